(define (domain d)
  (:predicates (p))
  (:functions (total-cost))
  (:action act
    :parameters ()
    :precondition (over all (p))  ;; expect: unexpected-time
    :effect (and (p)
      (at end (p))  ;; expect: unexpected-time
      (increase (total-cost) ?duration))))  ;; expect: unbound
