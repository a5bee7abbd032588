; One ferry carries one car at a time between any two quays.
(define (domain ferry)
  (:requirements :strips :typing)
  (:types quay car)
  (:predicates (ferry-at ?q - quay) (at ?c - car ?q - quay) (aboard ?c - car) (empty))
  (:action sail
    :parameters (?from ?to - quay)
    :precondition (ferry-at ?from)
    :effect (and (ferry-at ?to) (not (ferry-at ?from))))
  (:action board
    :parameters (?c - car ?q - quay)
    :precondition (and (at ?c ?q) (ferry-at ?q) (empty))
    :effect (and (aboard ?c) (not (at ?c ?q)) (not (empty))))
  (:action debark
    :parameters (?c - car ?q - quay)
    :precondition (and (aboard ?c) (ferry-at ?q))
    :effect (and (at ?c ?q) (empty) (not (aboard ?c)))))
