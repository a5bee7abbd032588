;; The domain that the malformed problems are written for.
;; hrcplan: success ask 0.8
;; hrcplan: range effort 0 10
(define (domain courier)
  (:requirements :strips :typing :negative-preconditions :equality :numeric-fluents
    :action-costs :durative-actions)
  (:types agent place item - object)
  (:constants depot - place)
  (:predicates
    (controllable ?a - agent)
    (at ?a - agent ?p - place)
    (road ?from ?to - place)
    (lies ?i - item ?p - place)
    (holding ?a - agent ?i - item))
  (:functions
    (distance ?from ?to - place)
    (effort ?a - agent)
    (total-cost))

  (:durative-action go
    :parameters (?a - agent ?from ?to - place)
    :duration (= ?duration (distance ?from ?to))
    :condition (and
      (at start (at ?a ?from))
      (over all (road ?from ?to)))
    :effect (and
      (at start (not (at ?a ?from)))
      (at end (at ?a ?to))
      (at start (increase (total-cost) (* 2 (effort ?a))))))

  (:action pick
    :parameters (?a - agent ?i - item ?p - place)
    :precondition (and (at ?a ?p) (lies ?i ?p))
    :effect (and (not (lies ?i ?p)) (holding ?a ?i) (increase (total-cost) (effort ?a))))

  (:action drop
    :parameters (?a - agent ?i - item)
    :precondition (and (at ?a depot) (holding ?a ?i))
    :effect (and (lies ?i depot) (not (holding ?a ?i)) (increase (total-cost) (effort ?a))))

  (:action ask
    :parameters (?a ?other - agent)
    :precondition (not (= ?a ?other))
    :effect (and (assign (effort ?other) 1) (increase (total-cost) 3))))
