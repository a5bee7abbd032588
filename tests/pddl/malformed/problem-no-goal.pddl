(define (problem p)  ;; expect: no-goal
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1)))
