(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal (and (at robot depot)
    (> (total-time) 5)))  ;; expect: unknown-function
  (:metric (total-cost)))  ;; expect: bad-metric
