;; Conditions and effects at start, over all and at end; effects of the start that the rest depends
;; on, also conditional ones; durations and costs from functions.
(define (domain phases)
  (:requirements :adl :typing :durative-actions :duration-inequalities :numeric-fluents)
  (:types room agent)
  (:predicates (in ?a - agent ?r - room) (lit ?r - room) (busy ?a - agent) (gas) (clean ?r - room) (lamp ?a - agent))
  (:functions (total-cost) (speed ?a - agent) (size ?r - room) (pay ?a - agent))
  (:durative-action go
    :parameters (?a - agent ?from ?to - room)
    :duration (= ?duration (/ (size ?to) (speed ?a)))
    :condition (and (at start (in ?a ?from)) (at start (not (busy ?a))) (over all (busy ?a))
      (over all (not (in ?a ?from))) (at end (busy ?a)) (at end (or (lit ?to) (lamp ?a))))
    :effect (and (at start (not (in ?a ?from))) (at start (busy ?a)) (at end (in ?a ?to))
      (at end (not (busy ?a))) (at start (increase (total-cost) (* (pay ?a) ?duration)))
      (at end (increase (total-cost) 1))))
  (:durative-action wipe
    :parameters (?a - agent ?r - room)
    :duration (and (>= ?duration 1) (<= ?duration (size ?r)))
    :condition (and (at start (in ?a ?r)) (over all (lit ?r)) (at end (not (gas))))
    :effect (and (at start (when (lamp ?a) (lit ?r))) (at end (when (lit ?r) (clean ?r)))
      (at start (when (gas) (not (gas)))) (at end (increase (total-cost) (pay ?a)))))
  (:durative-action flash
    :parameters (?r - room)
    :duration (= ?duration 2)
    :condition (and (at start (not (lit ?r))) (over all (lit ?r)))
    :effect (and (at start (lit ?r)) (at end (not (lit ?r))) (at end (gas))))
  (:durative-action wire
    :parameters (?r - room)
    :duration (= ?duration (size ?r))
    :condition (and (over all (forall (?a - agent) (not (in ?a ?r)))))
    :effect (and (at end (lit ?r)) (at end (not (clean ?r)))))
  (:action pick
    :parameters (?a - agent)
    :precondition (not (exists (?b - agent) (lamp ?b)))
    :effect (and (lamp ?a) (increase (total-cost) (pay ?a))))
  (:action drop
    :parameters (?a - agent)
    :precondition (lamp ?a)
    :effect (not (lamp ?a))))
