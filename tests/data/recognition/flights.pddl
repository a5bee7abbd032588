; People fly between cities; an aircraft burns one level of fuel a flight.
(define (domain flights)
  (:requirements :strips :typing)
  (:types city aircraft person level)
  (:predicates (plane-at ?a - aircraft ?c - city) (person-at ?p - person ?c - city) (in ?p - person ?a - aircraft)
    (fuel ?a - aircraft ?l - level) (below ?l ?m - level))
  (:action board
    :parameters (?p - person ?a - aircraft ?c - city) :precondition (and (person-at ?p ?c) (plane-at ?a ?c))
    :effect (and (in ?p ?a) (not (person-at ?p ?c))))
  (:action alight
    :parameters (?p - person ?a - aircraft ?c - city) :precondition (and (in ?p ?a) (plane-at ?a ?c))
    :effect (and (person-at ?p ?c) (not (in ?p ?a))))
  (:action fly
    :parameters (?a - aircraft ?from ?to - city ?m ?l - level)
    :precondition (and (plane-at ?a ?from) (fuel ?a ?m) (below ?l ?m))
    :effect (and (plane-at ?a ?to) (fuel ?a ?l) (not (plane-at ?a ?from)) (not (fuel ?a ?m))))
  (:action refuel
    :parameters (?a - aircraft ?l ?m - level) :precondition (and (fuel ?a ?l) (below ?l ?m))
    :effect (and (fuel ?a ?m) (not (fuel ?a ?l)))))
