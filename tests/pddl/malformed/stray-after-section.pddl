(define (domain d)
  (:types place))  ;; expect: stray-parenthesis
  (:predicates (at ?p - place))
  (:action go
    :parameters (?p - place)
    :effect (at ?q)))  ;; expect: unbound
