(define (domain d)
  (:predicates (p))
  (:functions (total-cost))
  (:action a :parameters () :effect (and (p)
    (increase (total-cost) 1.2.3)))  ;; expect: bad-number
  (:action b :parameters () :effect (and (p)
    (increase (total-cost) (+ 1,5 2))))  ;; expect: bad-number
  (:durative-action c :parameters ()
    :duration (= ?duration 10s)  ;; expect: bad-number
    :effect (at end (p))))
