; Drivers walk on paths and drive trucks on roads, to bring parcels.
(define (domain deliveries)
  (:requirements :strips :typing)
  (:types place thing - object driver truck parcel - thing)
  (:predicates (at ?t - thing ?p - place) (in ?x - parcel ?t - truck) (driving ?d - driver ?t - truck)
    (unmanned ?t - truck) (road ?a ?b - place) (path ?a ?b - place))
  (:action load
    :parameters (?x - parcel ?t - truck ?p - place)
    :precondition (and (at ?t ?p) (at ?x ?p))
    :effect (and (in ?x ?t) (not (at ?x ?p))))
  (:action unload
    :parameters (?x - parcel ?t - truck ?p - place)
    :precondition (and (at ?t ?p) (in ?x ?t))
    :effect (and (at ?x ?p) (not (in ?x ?t))))
  (:action get-in
    :parameters (?d - driver ?t - truck ?p - place)
    :precondition (and (at ?t ?p) (at ?d ?p) (unmanned ?t))
    :effect (and (driving ?d ?t) (not (at ?d ?p)) (not (unmanned ?t))))
  (:action get-out
    :parameters (?d - driver ?t - truck ?p - place)
    :precondition (and (at ?t ?p) (driving ?d ?t))
    :effect (and (at ?d ?p) (unmanned ?t) (not (driving ?d ?t))))
  (:action drive
    :parameters (?d - driver ?t - truck ?from ?to - place)
    :precondition (and (at ?t ?from) (driving ?d ?t) (road ?from ?to))
    :effect (and (at ?t ?to) (not (at ?t ?from))))
  (:action walk
    :parameters (?d - driver ?from ?to - place)
    :precondition (and (at ?d ?from) (path ?from ?to))
    :effect (and (at ?d ?to) (not (at ?d ?from)))))
