(define (domain d)
  (:predicates (p))
  (:action nothing  ;; expect: no-effect
    :parameters ()
    :precondition (p))
  (:action empty  ;; expect: no-effect
    :parameters () :effect (and))
  (:action something :parameters () :effect (p)))
