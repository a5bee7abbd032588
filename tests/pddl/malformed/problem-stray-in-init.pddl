(define (problem p)
  (:domain courier)
  (:objects robot - agent desk - place)
  (:init (at robot depot))  ;; expect: stray-parenthesis
    (= (effort robot) 1)
    (road depot dusk))  ;; expect: unknown-object
  (:goal (at robot depot)))
