(define (domain d)
  (:types place)
  (:predicats (at ?p - place))  ;; expect: unknown-section
  (:action go :parameters (?p - place) :effect (at ?p)))
