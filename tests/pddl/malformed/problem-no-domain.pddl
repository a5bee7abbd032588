(define (problem p)  ;; expect: no-domain
  (:objects robot - agent)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal (at robto depot)))  ;; expect: unknown-object
