(define (domain d)
  (:types place item - thing agent)  ;; expect: undeclared-supertype
  (:constants depot - plaice)  ;; expect: unknown-type
  (:predicates (at ?a - agnet ?p - place))  ;; expect: unknown-type
  (:action move
    :parameters (?a - agent ?p - (either place plac))  ;; expect: unknown-type
    :effect (at ?a ?p)))
