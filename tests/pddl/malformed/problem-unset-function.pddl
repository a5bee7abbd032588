(define (problem p)
  (:domain courier)
  (:objects human robot - agent desk shelf far - place)
  (:init  ;; expect: unset-function
    (at robot depot) (at human desk)
    (road depot desk) (road desk shelf)
    (= (distance depot desk) 5)
    (= (effort robot) 1))
  (:goal (at robot desk)))
