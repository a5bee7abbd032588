(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal (and
    (at robot depot))  ;; expect: stray-parenthesis
    (at robot dopot)))  ;; expect: unknown-object
  (:metric minimize (total-cost)))
