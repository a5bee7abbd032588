(define (domain d)
  (:requirements :strips)
  (:predicates (p))
  (:durative-action wait  ;; expect: missing-requirement
    :parameters ()
    :duration (and
      (>= ?duration 1)  ;; expect: missing-requirement
      (<= ?duration 5))
    :effect (at end (p))))
