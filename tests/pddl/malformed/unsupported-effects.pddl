(define (domain d)
  (:predicates (p) (q))
  (:functions (level) (total-cost))
  (:durative-action fill
    :parameters ()
    :duration (= ?duration 5)
    :condition (preference tidy (at start (p)))  ;; expect: unsupported
    :effect (and
      (increase (level) (* #t 2))  ;; expect: unsupported
      (at end (increase (level) #t))  ;; expect: unsupported
      (when (at start (p)) (at end (q)))))  ;; expect: unsupported
  (:action toss
    :parameters ()
    :precondition (sometime (p))  ;; expect: unsupported
    :effect (probabilistic 0.5 (p))))  ;; expect: unsupported
