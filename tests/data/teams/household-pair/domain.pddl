;; title: people and a robot of one household carry, wash, cook and water
;; source: written for hrcplan
;; time-unit: s
;; abstraction: a hand holds one thing; rooms hold any number of agents and things; agent state (motivation,
;;              effort in a room) is a cost per action, low = contributing

(define (domain household)
  (:requirements :strips :typing :numeric-fluents :action-costs :durative-actions)
  (:types agent room thing - object)

  (:predicates
    (controllable ?a - agent)          ; static: the robot
    (door ?from ?to - room)            ; static: the map
    (enters ?a - agent ?r - room)      ; static: where an agent can go
    (cooks ?a - agent)                 ; static: who can use the stove
    (strong ?a - agent)                ; static: who can lift what is heavy
    (light ?t - thing)                 ; static
    (heavy ?t - thing)                 ; static
    (has-stove ?r - room)              ; static
    (has-water ?r - room)              ; static
    (dish ?t - thing)                  ; static: what is cooked
    (linen ?t - thing)                 ; static: what is washed
    (plant ?t - thing)                 ; static: what is watered
    (at ?a - agent ?r - room)
    (lies ?t - thing ?r - room)
    (free ?a - agent)                  ; the hand is empty
    (carries ?a - agent ?t - thing)
    (idle ?a - agent)                  ; token: one action per agent at a time
    (cooked ?t - thing)
    (washed ?t - thing)
    (watered ?t - thing))

  (:functions
    (motivation ?a - agent)
    (effort ?a - agent ?r - room)
    (total-cost))

  (:durative-action go
    :parameters (?a - agent ?from - room ?to - room)
    :duration (= ?duration 10)
    :condition (and (at start (idle ?a)) (at start (at ?a ?from)) (at start (door ?from ?to))
      (at start (enters ?a ?to)))
    :effect (and (at start (not (idle ?a))) (at start (not (at ?a ?from))) (at end (at ?a ?to))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?to))))))

  (:durative-action pick-up
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 5)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (at start (lies ?t ?r))
      (at start (free ?a)) (at start (light ?t)))
    :effect (and (at start (not (idle ?a))) (at start (not (lies ?t ?r))) (at start (not (free ?a)))
      (at end (carries ?a ?t)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r))))))

  (:durative-action lift
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 10)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (at start (lies ?t ?r))
      (at start (free ?a)) (at start (heavy ?t)) (at start (strong ?a)))
    :effect (and (at start (not (idle ?a))) (at start (not (lies ?t ?r))) (at start (not (free ?a)))
      (at end (carries ?a ?t)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r))))))

  (:durative-action put-down
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 5)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (at start (carries ?a ?t)))
    :effect (and (at start (not (idle ?a))) (at start (not (carries ?a ?t))) (at end (lies ?t ?r))
      (at end (free ?a)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r))))))

  (:durative-action cook
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 60)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (over all (lies ?t ?r))
      (at start (has-stove ?r)) (at start (dish ?t)) (at start (cooks ?a)))
    :effect (and (at start (not (idle ?a))) (at end (cooked ?t)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r))))))

  (:durative-action wash
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 40)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (over all (lies ?t ?r))
      (at start (has-water ?r)) (at start (linen ?t)))
    :effect (and (at start (not (idle ?a))) (at end (washed ?t)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r))))))

  (:durative-action water
    :parameters (?a - agent ?t - thing ?r - room)
    :duration (= ?duration 5)
    :condition (and (at start (idle ?a)) (over all (at ?a ?r)) (over all (carries ?a ?t))
      (at start (has-water ?r)) (at start (plant ?t)))
    :effect (and (at start (not (idle ?a))) (at end (watered ?t)) (at end (idle ?a))
      (at start (increase (total-cost) (+ (motivation ?a) (effort ?a ?r)))))))
