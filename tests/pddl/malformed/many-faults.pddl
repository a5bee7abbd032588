(define (domain d)
  (:requirements :strips :typing :no-such-thing)  ;; expect: unknown-requirement
  (:types place item - objekt)  ;; expect: undeclared-supertype
  (:predicates (at ?p - place) (at ?i - item))  ;; expect: duplicate-predicate
  (:functons (total-cost))  ;; expect: unknown-section
  (:action go
    :parameters (?from ?to - place ?to - place)  ;; expect: repeated-parameter
    :precondition (and
      (at ?form)  ;; expect: unbound
      (at ?from ?to))  ;; expect: wrong-arity
    :effect (and (at ?to) (increase (total-cost) 1.5.2)))  ;; expect: bad-number
  (:action go  ;; expect: duplicate-action no-effect
    :parameters ()))
