(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:init (at robot depot)  ;; expect: unclosed
    (= (effort robot) 1)
  (:goal (lies cup depot)))  ;; expect: unknown-object
