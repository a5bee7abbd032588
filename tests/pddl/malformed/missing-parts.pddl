(define (domain d)
  (:predicates (p))
  (:action  ;; expect: no-name
    :parameters () :effect (p))
  (:action half :parameters ()
    :precondition  ;; expect: missing-part
    :effect (p))
  (:durative-action timeless  ;; expect: no-duration
    :parameters () :effect (at end (p)))
  (:durative-action strange :parameters ()
    :duration 5  ;; expect: bad-duration
    :effect (at end (p))))
