(define (domain d)
  (:predicates (p))
  (:action one
    :parameters ()
    :effect (q)))  ;; expect: unknown-predicate
  )  ;; expect: stray-parenthesis
