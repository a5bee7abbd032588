;; hrcplan: success ask 0.5  ;; expect: bad-note
(define (problem p)
  (:domain courier)
  (:objects robot - agent)
  (:length (:serial 5) (:parallel 3))  ;; expect: ignored-section
  (:init (at robot depot) (= (effort robot) 1)
    (at 10 (not (at robot depot))))  ;; expect: missing-requirement
  (:constraints (never (at robot depot)))  ;; expect: not-a-constraint missing-requirement
  (:goal (and (at robot depot)  ;; expect: missing-requirement
    (preference neat (at robot depot))
    (or (preference tidy (at robot depot)))))  ;; expect: unsupported missing-requirement
  (:metric minimize (is-violated tidy)))  ;; expect: unknown-preference
