; Cranes stack crates on pallets and other crates; trucks carry them between places.
(define (domain cranes)
  (:requirements :strips :typing)
  (:types place truck crane surface - object pallet crate - surface)
  (:predicates (truck-at ?t - truck ?p - place) (crane-at ?k - crane ?p - place) (surface-at ?s - surface ?p - place)
    (on ?c - crate ?s - surface) (in ?c - crate ?t - truck) (holds ?k - crane ?c - crate)
    (free ?k - crane) (clear ?s - surface))
  (:action drive
    :parameters (?t - truck ?from ?to - place) :precondition (truck-at ?t ?from)
    :effect (and (truck-at ?t ?to) (not (truck-at ?t ?from))))
  (:action lift
    :parameters (?k - crane ?c - crate ?s - surface ?p - place)
    :precondition (and (crane-at ?k ?p) (surface-at ?c ?p) (on ?c ?s) (clear ?c) (free ?k))
    :effect (and (holds ?k ?c) (clear ?s) (not (surface-at ?c ?p)) (not (on ?c ?s)) (not (clear ?c)) (not (free ?k))))
  (:action drop
    :parameters (?k - crane ?c - crate ?s - surface ?p - place)
    :precondition (and (crane-at ?k ?p) (holds ?k ?c) (surface-at ?s ?p) (clear ?s))
    :effect (and (free ?k) (surface-at ?c ?p) (on ?c ?s) (clear ?c) (not (holds ?k ?c)) (not (clear ?s))))
  (:action load
    :parameters (?k - crane ?c - crate ?t - truck ?p - place)
    :precondition (and (crane-at ?k ?p) (truck-at ?t ?p) (holds ?k ?c))
    :effect (and (in ?c ?t) (free ?k) (not (holds ?k ?c))))
  (:action unload
    :parameters (?k - crane ?c - crate ?t - truck ?p - place)
    :precondition (and (crane-at ?k ?p) (truck-at ?t ?p) (in ?c ?t) (free ?k))
    :effect (and (holds ?k ?c) (not (in ?c ?t)) (not (free ?k)))))
