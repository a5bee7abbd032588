(define (domain d)
  (:predicates (p) (q))
  (:functions (total-cost))
  (:durative-action act
    :parameters ()
    :duration (= ?duration 5)
    :condition (and
      (p)  ;; expect: no-time
      (at begin (q)))  ;; expect: no-time
    :effect (and
      (q)  ;; expect: no-time
      (over all (p))  ;; expect: no-time
      (increase (total-cost) 1))))  ;; expect: no-time
