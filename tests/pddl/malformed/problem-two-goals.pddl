(define (problem p)
  (:domain courier)
  (:objects robot - agent cup - item)
  (:init (at robot depot) (= (effort robot) 1))
  (:goal (at robot depot)
    (holding robot cup)))  ;; expect: stray-word
