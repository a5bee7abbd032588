(define (domain)  ;; expect: no-name
  (:predicates (p))
  (:action act :parameters () :effect (q)))  ;; expect: unknown-predicate
