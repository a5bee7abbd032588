(define (domain d)
  (:predicates (p) (q))
  (:functions (level) (total-cost))
  (:durative-action fill
    :parameters ()
    :duration (= ?duration 5)
    :condition (preference tidy (over all (p)))  ;; expect: unsupported
    :effect (and
      (increase (level) (* #t 2))
      (at end (increase (level) #t))  ;; expect: unknown-function
      (when (at start (p)) (at end (q)))
      (when (over all (p)) (at end (q)))  ;; expect: unsupported
      (when (at end (p)) (at start (q)))))  ;; expect: not-an-effect
  (:action toss
    :parameters ()
    :precondition (sometime (p))  ;; expect: not-a-condition
    :effect (probabilistic 0.5 (p))))  ;; expect: unsupported
