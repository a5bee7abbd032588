(define (problem p)
  (:domain courrier)  ;; expect: domain-mismatch
  (:objects robot - agent)
  (:init (at robot depott) (= (effort robot) 1))  ;; expect: unknown-object
  (:goal (at robot depot)))
