(define (domain d)
  (:types place)
  (:predicates (at ?p - place) (near ?p ?q - place))
  (:action go
    :parameters (?from - place)
    :precondition (and (at ?from)
      (near ?from ?to)  ;; expect: unbound
      (forall (?q - place) (near ?q ?from)))
    :effect (at ?q)))  ;; expect: unbound
