(define (domain d)
  (:predicates (p))
  (:agents a b)  ;; expect: unknown-section
  (:objects x y)  ;; expect: unknown-section
  (:action go :parameters ()
    :precondtion (q)  ;; expect: unknown-section unknown-predicate
    :duration (= ?duration 5)  ;; expect: unknown-section
    :effect (p))
  (p)  ;; expect: unknown-section
  stray)  ;; expect: stray-word
