(define (problem p)
  (:domain courier)
  (:objects robot - agent desk - place
    robot - agent  ;; expect: duplicate-object
    depot - place
    depot - item  ;; expect: duplicate-object
    ?x - item  ;; expect: not-a-name
    both - (either item place))  ;; expect: unsupported
  (:init (at robot desk) (= (effort robot) 1))
  (:goal (at robot depot)))
