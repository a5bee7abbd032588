(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot)
    (= (effort robot) 1.2.3)  ;; expect: bad-number
    (= (distance depot depot) ten)  ;; expect: bad-number
    (= (total-cost) --5)  ;; expect: bad-number
    (= (total-cost) (+ 1 2))  ;; expect: bad-number
    (= (effort robot)))  ;; expect: not-a-fact
  (:goal (at robot depot))
  (:metric minimize (* 0,5 (total-time))))  ;; expect: bad-number
