(define (domain d)
  (:types agent place)
  (:predicates (at ?a - agent ?p - place) (free ?a - agent))
  (:action move
    :parameters (?a - agent ?p - place)
    :precondition (and (fre ?a)  ;; expect: unknown-predicate
      (not (at ?a ?p)))
    :effect (att ?a ?p)))  ;; expect: unknown-predicate
