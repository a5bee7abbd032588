;; title: a worker, a cart and a forklift bring crates to their places
;; source: written for hrcplan
;; abstraction: each agent carries one crate; only the worker labels, only the forklift reaches the
;;              shelf, and the cart does not leave its lane

(define (domain depot)
  (:requirements :strips :typing :action-costs)
  (:types agent place crate - object)
  (:predicates
    (controllable ?a - agent)          ; static: the robots
    (lane ?a - agent ?from ?to - place) ; static: who drives or walks from where to where
    (hands ?a - agent)                 ; static: who can label
    (fits ?a - agent ?c - crate)       ; static: who can carry what
    (at ?a - agent ?p - place)
    (on ?c - crate ?p - place)
    (empty ?a - agent)
    (loaded ?a - agent ?c - crate)
    (labelled ?c - crate))
  (:functions (effort ?a - agent) (total-cost))
  (:action drive
    :parameters (?a - agent ?from - place ?to - place)
    :precondition (and (at ?a ?from) (lane ?a ?from ?to))
    :effect (and (at ?a ?to) (not (at ?a ?from)) (increase (total-cost) (effort ?a))))
  (:action load
    :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (empty ?a) (fits ?a ?c))
    :effect (and (loaded ?a ?c) (not (on ?c ?p)) (not (empty ?a)) (increase (total-cost) (effort ?a))))
  (:action unload
    :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (loaded ?a ?c))
    :effect (and (on ?c ?p) (empty ?a) (not (loaded ?a ?c)) (increase (total-cost) (effort ?a))))
  (:action label
    :parameters (?a - agent ?c - crate ?p - place)
    :precondition (and (at ?a ?p) (on ?c ?p) (hands ?a))
    :effect (and (labelled ?c) (increase (total-cost) (effort ?a)))))
