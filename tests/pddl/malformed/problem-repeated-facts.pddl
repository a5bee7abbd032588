(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot)
    (= (effort robot) 1)
    (at robot depot)  ;; expect: duplicate-fact
    (= (effort robot) 1.0)  ;; expect: duplicate-fact
    (= (effort robot) 2))  ;; expect: duplicate-value
  (:goal (at robot depot)))
