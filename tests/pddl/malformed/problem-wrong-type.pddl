(define (problem p)
  (:domain courier)
  (:objects human robot - agent desk - place cup - item)
  (:init
    (at desk human)  ;; expect: wrong-type
    (at human)  ;; expect: wrong-arity
    (= (effort desk) 1)  ;; expect: wrong-type
    (= (effort) 1)  ;; expect: wrong-arity
    (road desk depot))
  (:goal (holding cup robot)))  ;; expect: wrong-type
