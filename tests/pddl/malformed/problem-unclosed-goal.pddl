(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal (and  ;; expect: unclosed
    (at robot depot)
    (at robot dopot))  ;; expect: unknown-object
  (:metric minimize (total-cost)))
