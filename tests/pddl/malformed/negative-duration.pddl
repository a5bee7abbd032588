(define (domain d)
  (:predicates (p))
  (:durative-action back :parameters ()
    :duration (= ?duration -5)  ;; expect: negative-duration
    :effect (at end (p)))
  (:durative-action computed :parameters ()
    :duration (and (>= ?duration -1)
      (<= ?duration (- 2 3)))  ;; expect: negative-duration
    :effect (at end (p))))
