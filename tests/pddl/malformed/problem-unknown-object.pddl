(define (problem p)
  (:domain courier)
  (:objects human robot - agent desk - place cup - itme)  ;; expect: unknown-type
  (:init
    (at human desk)
    (at robto desk)  ;; expect: unknown-object
    (lies cup desk)
    (lies cup depot)
    (= (effort humann) 1)  ;; expect: unknown-object
    (on cup desk))  ;; expect: unknown-predicate
  (:goal (and (lies cup depot) (lies cupp depot))))  ;; expect: unknown-object
