(define (domain d)
  (:types place)
  (:predicates
    (at ?p - place))  ;; expect: stray-parenthesis
    (near ?p ?q - place))
  (:action go
    :parameters (?p ?q - place)
    :precondition (naer ?p ?q)  ;; expect: unknown-predicate
    :effect (at ?q)))
