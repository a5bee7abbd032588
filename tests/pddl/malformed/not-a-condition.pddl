(define (domain d)
  (:predicates (p) (same ?x))
  (:functions (f))
  (:action act
    :parameters (?x)
    :precondition (and
      p  ;; expect: not-a-condition
      ((p))  ;; expect: not-a-condition
      (same (f))  ;; expect: not-a-term
      (> (f) ?x)  ;; expect: not-a-number
      (> (f) (p))  ;; expect: unknown-function
      (f)  ;; expect: unknown-predicate
      (< (f)))  ;; expect: wrong-arity
    :effect (p)))
