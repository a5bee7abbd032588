(define (domain d)
  (:predicates (p))
  (:functions (total-cost))
  (:durative-action one
    :parameters ()
    :duration (= ?duration (/ 5 0))  ;; expect: bad-number
    :effect (and (at end (p))
      (at end (increase (total-cost) (+)))))  ;; expect: wrong-arity
  (:action two
    :parameters ()
    :effect (p)))
