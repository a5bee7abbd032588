(define (domain d)
  (:types place)
  (:predicates (at ?p - place) (near ?p ?q - place))
  (:action go
    :parameters (?p ?q - place))  ;; expect: stray-parenthesis
    :precondition (and
      (at ?p))  ;; expect: stray-parenthesis
      (near ?p ?q))
    :effect (and
      (not (at ?p)))  ;; expect: stray-parenthesis
      (at ?r))))  ;; expect: unbound
