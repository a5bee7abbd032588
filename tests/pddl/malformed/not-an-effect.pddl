(define (domain d)
  (:predicates (p) (q))
  (:functions (f))
  (:action act
    :parameters (?x)
    :effect (and
      (or (p) (q))  ;; expect: not-an-effect
      (not (not (p)))  ;; expect: not-an-effect
      (= (f) 5)  ;; expect: not-an-effect
      p  ;; expect: not-an-effect
      ((q))  ;; expect: not-an-effect
      (exists (?y) (p)))))  ;; expect: not-an-effect
