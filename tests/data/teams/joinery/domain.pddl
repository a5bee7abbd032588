;; title: a joiner and a robot paint parts and glue them together; paint and glue cannot be undone
;; source: written for hrcplan
;; abstraction: a hand holds one part; both spray, the joiner glues, and the robot carries the legs

(define (domain joinery)
  (:requirements :strips :typing :negative-preconditions :action-costs)
  (:types agent place part colour - object)
  (:predicates
    (controllable ?a - agent)          ; static: the robot
    (way ?from ?to - place)            ; static: the map
    (sprays ?a - agent)                ; static: who can paint
    (glues ?a - agent)                 ; static: who can glue
    (lifts ?a - agent ?x - part)       ; static: who can carry what
    (booth ?p - place)                 ; static: where parts are painted
    (bench ?p - place)                 ; static: where parts are glued
    (joint ?top ?base - part)          ; static: which parts can be glued
    (at ?a - agent ?p - place)
    (on ?x - part ?p - place)
    (free ?a - agent)
    (holds ?a - agent ?x - part)
    (raw ?x - part)
    (painted ?x - part ?c - colour)
    (glued ?top ?base - part))
  (:functions (motivation ?a - agent) (total-cost))
  (:action walk
    :parameters (?a - agent ?from - place ?to - place)
    :precondition (and (at ?a ?from) (way ?from ?to))
    :effect (and (at ?a ?to) (not (at ?a ?from)) (increase (total-cost) (motivation ?a))))
  (:action take
    :parameters (?a - agent ?x - part ?p - place)
    :precondition (and (at ?a ?p) (on ?x ?p) (free ?a) (lifts ?a ?x))
    :effect (and (holds ?a ?x) (not (on ?x ?p)) (not (free ?a)) (increase (total-cost) (motivation ?a))))
  (:action lay
    :parameters (?a - agent ?x - part ?p - place)
    :precondition (and (at ?a ?p) (holds ?a ?x))
    :effect (and (on ?x ?p) (free ?a) (not (holds ?a ?x)) (increase (total-cost) (motivation ?a))))
  (:action spray
    :parameters (?a - agent ?x - part ?c - colour ?p - place)
    :precondition (and (at ?a ?p) (on ?x ?p) (booth ?p) (sprays ?a) (raw ?x))
    :effect (and (painted ?x ?c) (not (raw ?x)) (increase (total-cost) (motivation ?a))))
  (:action glue
    :parameters (?a - agent ?x - part ?y - part ?p - place)
    :precondition (and (at ?a ?p) (holds ?a ?x) (on ?y ?p) (bench ?p) (glues ?a) (joint ?x ?y))
    :effect (and (glued ?x ?y) (free ?a) (not (holds ?a ?x)) (increase (total-cost) (motivation ?a)))))
