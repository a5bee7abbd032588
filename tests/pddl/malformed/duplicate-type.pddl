(define (domain d)
  (:types agent place - object
    agent - place)  ;; expect: duplicate-type
  (:constants depot - place
    depot - place)  ;; expect: duplicate-object
  (:predicates (at ?p - place))
  (:action go :parameters (?a - agent) :effect (at depot)))
