;; Agent state that actions change: guarded, assigned, for all agents at once, under a condition,
;; at both ends of a durative action; read by conditions, durations, costs and the goal.
(define (domain interaction)
  (:requirements :adl :typing :numeric-fluents :durative-actions)
  (:types agent job - object human - agent)
  (:predicates (done ?j - job) (calm))
  (:functions (total-cost) (motivation ?a - agent) (skill ?a - agent ?j - job) (rest ?a - agent))
  (:durative-action work
    :parameters (?a - agent ?j - job)
    :duration (= ?duration (+ 1 (motivation ?a)))
    :condition (and (at start (not (done ?j))) (at start (<= (motivation ?a) 4))
      (over all (exists (?b - agent) (<= (motivation ?b) 2))))
    :effect (and (at end (done ?j)) (at end (increase (motivation ?a) 1))
      (at start (increase (total-cost) (+ (motivation ?a) (skill ?a ?j))))
      (at end (increase (total-cost) (* 2 ?duration)))))
  (:action encourage
    :parameters (?r - agent ?h - human)
    :precondition (and (not (= ?r ?h)) (>= (motivation ?h) 2))
    :effect (and (decrease (motivation ?h) 2) (increase (total-cost) (rest ?r))))
  (:action holiday
    :parameters ()
    :precondition (exists (?j - job) (done ?j))
    :effect (and (forall (?h - human) (assign (motivation ?h) 0)) (when (calm) (not (calm)))))
  (:action fret
    :parameters (?h - human)
    :precondition (< (motivation ?h) 3)
    :effect (and (calm) (when (calm) (assign (motivation ?h) 3)))))
