(define (domain d)
  (:predicates (p) (q))
  (:action one
    :parameters ()
    :precondition (and
      (p)
      (q  ;; expect: unclosed
    )
    :effect (p))
  (:action two  ;; expect: unclosed
    :parameters ()
    :effect (and
      (q)
      (r)  ;; expect: unknown-predicate
    )
)
