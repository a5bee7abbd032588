(define (domain d)
  (:types place)
  (:predicates (at ?p - place) (near ?p ?q - place))
  (:action go
    :parameters (?p ?q - place)
    :precondition (and
      (at ?p  ;; expect: unclosed
      (near ?p ?q))
    :effect (and
      (at ?q)
      (not (at ?p)  ;; expect: unclosed
    )
  )
)
