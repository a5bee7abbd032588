(define (domain d)
  (:types place)
  (:constants depot - place)
  (:predicates (at ?p - place))
  (:action go
    :parameters ()
    :precondition (at depott)  ;; expect: unknown-object
    :effect (at depot)))
