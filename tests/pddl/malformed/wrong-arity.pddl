(define (domain d)
  (:requirements :strips :typing :equality :numeric-fluents)
  (:types place)
  (:predicates (road ?from ?to - place) (at ?p - place))
  (:functions (length ?from ?to - place) (total-cost))
  (:action go
    :parameters (?from ?to - place)
    :precondition (and (at ?from)
      (road ?from)  ;; expect: wrong-arity
      (not (= ?from ?to) (at ?to)))  ;; expect: wrong-arity
    :effect (and (at ?from ?to)  ;; expect: wrong-arity
      (increase (total-cost) (length ?from ?to ?to))  ;; expect: wrong-arity
      (increase (total-cost)))))  ;; expect: wrong-arity
