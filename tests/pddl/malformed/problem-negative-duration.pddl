(define (problem p)
  (:domain courier)
  (:objects robot - agent desk - place)
  (:init
    (at robot depot) (= (effort robot) 1)
    (road depot desk) (road desk depot)
    (= (distance depot desk) 5)
    (= (distance desk depot) -5)  ;; expect: negative-duration
    (= (distance desk desk) -5))
  (:goal (at robot desk)))
