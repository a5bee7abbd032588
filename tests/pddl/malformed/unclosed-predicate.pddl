(define (domain d)
  (:types place)
  (:predicates
    (at ?p - place)
    (near ?p ?q - place  ;; expect: unclosed
    (open ?p - place))
  (:action go
    :parameters (?p - place)
    :precondition (opne ?p)  ;; expect: unknown-predicate
    :effect (at ?p)))
