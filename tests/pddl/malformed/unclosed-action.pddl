(define (domain d)
  (:predicates (p))
  (:action one  ;; expect: unclosed
    :parameters ()
    :effect (p)
  (:action two
    :parameters ()
    :effect (q))  ;; expect: unknown-predicate
  (:action three :parameters () :effect (p)))
