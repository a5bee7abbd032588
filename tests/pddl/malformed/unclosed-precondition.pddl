(define (domain d)
  (:types place)
  (:predicates (at ?p - place) (near ?p ?q - place))
  (:action go
    :parameters (?p ?q - place)
    :precondition (and  ;; expect: unclosed
      (at ?p)
      (near ?p ?q)
    :effect (and (at ?q) (att ?p)))  ;; expect: unknown-predicate
  (:action stay
    :parameters (?p - place)
    :effect (at ?p ?p)))  ;; expect: wrong-arity
