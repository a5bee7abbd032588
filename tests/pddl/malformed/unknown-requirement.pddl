(define (domain d)
  (:requirements :strips :typping :typing)  ;; expect: unknown-requirement
  (:types place)
  (:predicates (at ?p - place))
  (:action go :parameters (?p - place) :effect (at ?p)))
