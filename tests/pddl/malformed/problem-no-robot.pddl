(define (problem p)
  (:domain courier)
  (:objects alice bob - agent)
  (:init  ;; expect: no-robot
    (at alice depot) (= (effort alice) 1) (= (effort bob) 1))
  (:goal (at alice depot)))
