(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal))  ;; expect: no-goal
