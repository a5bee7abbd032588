(define (domain d)
  (:types agent place)
  (:predicates (at ?a - agent ?a - place))  ;; expect: repeated-parameter
  (:action go
    :parameters (?a - agent ?p - place ?p - place)  ;; expect: repeated-parameter
    :effect (at ?a ?p)))
