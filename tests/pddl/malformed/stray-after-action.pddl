(define (domain d)
  (:predicates (p))
  (:action one
    :parameters ()
    :effect (p)))  ;; expect: stray-parenthesis
  (:action two
    :parameters ()
    :effect (q)))  ;; expect: unknown-predicate
