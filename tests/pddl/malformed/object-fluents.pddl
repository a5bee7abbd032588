(define (domain d)
  (:types place)
  (:predicates (p))
  (:functions
    (where ?x) - place  ;; expect: unsupported
    (weight ?x) - number)
  (:action act :parameters () :effect (p)))
