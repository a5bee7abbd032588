;; title: transport with a robot that helps: it can remind, instruct and assist the human
;; source: transport.pddl, of which every action is repeated here word for word
;; changed: interactions are added. Izquierdo-Badiola et al. propose them as future work; their price, what
;;          they leave, and how often they succeed are ours
;; time-unit: s
;; abstraction: as in transport.pddl; both agents stand still for an interaction
;; hrcplan: success remind 0.8
;; hrcplan: success instruct 0.8
;; hrcplan: success assist 0.8
;; hrcplan: say move go to, walk to, drive to, head to, come to
;; hrcplan: say grasp pick up, grab, get, lift, fetch
;; hrcplan: say place put down, put, drop, set down, leave
;; hrcplan: say take take over, take off, take from
;; hrcplan: call wp waypoint
;; hrcplan: call box parcel
;; hrcplan: show box orange
;; hrcplan: show idle hide
;; hrcplan: say remind motivate, cheer
;; hrcplan: say instruct explain, show, teach, tell
;; hrcplan: say assist help

(define (domain transport-coached)
  (:requirements :strips :typing :numeric-fluents :action-costs :durative-actions)

  (:types agent wp box - object)

  (:predicates
    (controllable ?a - agent)           ; static: the robot
    (partner ?a ?other - agent)         ; static: ?a may take a box out of the hand of ?other
    (coach ?a ?other - agent)           ; static: ?a may remind, instruct and assist ?other
    (path ?from ?to - wp)               ; static: the map
    (reach ?a - agent ?w - wp)          ; static: where ?a can go
    (at ?a - agent ?w - wp)
    (box-at ?b - box ?w - wp)
    (free ?a - agent)                   ; the hand is empty
    (holding ?a - agent ?b - box)
    (idle ?a - agent))                  ; token: one action per agent at a time

  (:functions
    (knowledge ?a - agent)
    (motivation ?a - agent)
    (capacity ?a - agent ?w - wp)
    (help-price)                        ; what an interaction costs whoever does it
    (residual)                          ; the agent state that an interaction leaves
    (total-cost))

  (:durative-action move
    :parameters (?a - agent ?from - wp ?to - wp)
    :duration (= ?duration 50)
    :condition (and
      (at start (idle ?a))
      (at start (at ?a ?from))
      (at start (path ?from ?to))
      (at start (reach ?a ?to)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (at ?a ?from)))
      (at end (at ?a ?to))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?to))))))

  (:durative-action grasp
    :parameters (?a - agent ?b - box ?w - wp)
    :duration (= ?duration 50)
    :condition (and
      (at start (idle ?a))
      (at start (free ?a))
      (at start (box-at ?b ?w))
      (at start (at ?a ?w))
      (over all (at ?a ?w)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (free ?a)))
      (at start (not (box-at ?b ?w)))
      (at end (holding ?a ?b))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?w))))))

  (:durative-action place
    :parameters (?a - agent ?b - box ?w - wp)
    :duration (= ?duration 50)
    :condition (and
      (at start (idle ?a))
      (at start (holding ?a ?b))
      (at start (at ?a ?w))
      (over all (at ?a ?w)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (holding ?a ?b)))
      (at end (box-at ?b ?w))
      (at end (free ?a))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?w))))))

  ;; Both agents stand still for it, but only the taker works: the price is the taker's.
  (:durative-action take
    :parameters (?a - agent ?b - box ?from - agent ?w - wp)
    :duration (= ?duration 50)
    :condition (and
      (at start (partner ?a ?from))
      (at start (idle ?a))
      (at start (idle ?from))
      (at start (free ?a))
      (at start (holding ?from ?b))
      (at start (at ?a ?w))
      (at start (at ?from ?w))
      (over all (at ?a ?w))
      (over all (at ?from ?w)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (idle ?from)))
      (at start (not (free ?a)))
      (at start (not (holding ?from ?b)))
      (at end (holding ?a ?b))
      (at end (free ?from))
      (at end (idle ?a))
      (at end (idle ?from))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?w))))))

  ;; Interactions, planned where they pay: they better a state down to what they leave (residual). One
  ;; that fails leaves everything as it was. Help with a place (capacity) is given at the place.

  (:durative-action remind
    :parameters (?a ?other - agent)
    :duration (= ?duration 50)
    :condition (and
      (at start (coach ?a ?other))
      (at start (> (motivation ?other) (residual)))
      (at start (idle ?a))
      (at start (idle ?other)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (idle ?other)))
      (at end (assign (motivation ?other) (residual)))
      (at end (idle ?a))
      (at end (idle ?other))
      (at start (increase (total-cost) (help-price)))))

  (:durative-action instruct
    :parameters (?a ?other - agent)
    :duration (= ?duration 50)
    :condition (and
      (at start (coach ?a ?other))
      (at start (> (knowledge ?other) (residual)))
      (at start (idle ?a))
      (at start (idle ?other)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (idle ?other)))
      (at end (assign (knowledge ?other) (residual)))
      (at end (idle ?a))
      (at end (idle ?other))
      (at start (increase (total-cost) (help-price)))))

  (:durative-action assist
    :parameters (?a ?other - agent ?w - wp)
    :duration (= ?duration 50)
    :condition (and
      (at start (coach ?a ?other))
      (at start (> (capacity ?other ?w) (residual)))
      (at start (idle ?a))
      (at start (idle ?other))
      (at start (at ?a ?w))
      (over all (at ?a ?w)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (idle ?other)))
      (at end (assign (capacity ?other ?w) (residual)))
      (at end (idle ?a))
      (at end (idle ?other))
      (at start (increase (total-cost) (help-price))))))
