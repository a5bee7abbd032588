(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at ?r depot)  ;; expect: unbound
    (= (effort ?r) 1)  ;; expect: unbound
    robot  ;; expect: not-a-fact
    (and (at robot depot)))  ;; expect: not-a-fact
  (:goal (at robot ?where)))  ;; expect: unbound
