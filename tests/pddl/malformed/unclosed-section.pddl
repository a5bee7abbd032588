(define (domain d)
  (:types place)
  (:predicates  ;; expect: unclosed
    (at ?p - place)
    (near ?p ?q - place)
  (:functions (total-cost))
  (:action go
    :parameters (?p - plac)  ;; expect: unknown-type
    :effect (at ?p)))
