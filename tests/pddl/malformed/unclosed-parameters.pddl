(define (domain d)
  (:types place)
  (:predicates (at ?p - place))
  (:action go
    :parameters (?p ?q - place  ;; expect: unclosed
    :precondition (at ?p)
    :effect (at ?r)))  ;; expect: unbound
