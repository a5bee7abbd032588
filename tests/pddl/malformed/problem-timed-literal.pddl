(define (problem p)
  (:domain courier)
  (:requirements :timed-initial-literals)
  (:objects b - item robot - agent)
  (:init
    (at 4 (lies b depot))
    (at 5 ((lies b depot)))  ;; expect: not-a-fact
    (at 6 (not ((lies b depot))))  ;; expect: not-a-fact
    (at 6 ())  ;; expect: not-a-fact
    (at 6 (= (effort robot)))  ;; expect: not-a-fact
    (at 7 (lies depot)))  ;; expect: wrong-arity
  (:goal (lies b depot)))
