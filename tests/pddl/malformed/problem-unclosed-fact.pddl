(define (problem p)
  (:domain courier)
  (:objects human robot - agent desk - place cup - item)
  (:init
    (at human desk)
    (at robot desk  ;; expect: unclosed
    (lies cup dessk)  ;; expect: unknown-object
    (= (effort robot) 1)
    (= (effort human) 1))
  (:goal (lies cup depot)))
