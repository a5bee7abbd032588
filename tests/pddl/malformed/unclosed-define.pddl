(define (domain d)  ;; expect: unclosed
  (:predicates (p))
  (:action one
    :parameters ()
    :effect (q))  ;; expect: unknown-predicate
