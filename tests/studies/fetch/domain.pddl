;; A task that no Python knows: items are fetched, tiring the one who fetches.

(define (domain fetch)
  (:requirements :strips :typing :numeric-fluents :action-costs :durative-actions)
  (:types agent item - object)
  (:predicates (controllable ?a - agent) (here ?i - item) (away ?i - item) (rested ?a - agent))
  (:functions (tiredness ?a - agent) (total-cost))
  (:durative-action fetch
    :parameters (?a - agent ?i - item)
    :duration (= ?duration 10)
    :condition (and (at start (rested ?a)) (at start (away ?i)))
    :effect (and
      (at start (not (rested ?a)))
      (at start (not (away ?i)))
      (at end (here ?i))
      (at end (rested ?a))
      (at start (increase (total-cost) (tiredness ?a))))))
