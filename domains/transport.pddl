;; title: a human and a robot carry boxes between waypoints
;; source: Izquierdo-Badiola, Canal, Rizzo, Alenyà: Improved Task Planning through Failure Anticipation
;;         in Human-Robot Collaboration (sections III and IV: the actions, the agent model, the cost sum)
;; changed: conditions and effects are ours (the paper prints move without them); take is added, so that
;;          a box in the hand of an agent that stopped contributing is no dead end; the map (path) and
;;          the reach of each agent (reach) are facts of the problem
;; time-unit: s
;; abstraction: every action lasts 50 s; a hand holds one box; waypoints hold any number of agents and boxes;
;;              agent state (knowledge, motivation, capacity) is a cost per action, low = contributing
;; hrcplan: say move go to, walk to, drive to, head to, come to
;; hrcplan: say grasp pick up, grab, get, lift, fetch
;; hrcplan: say place put down, put, drop, set down, leave
;; hrcplan: say take take over, take off, take from
;; hrcplan: call wp waypoint
;; hrcplan: call box parcel
;; hrcplan: show box orange
;; hrcplan: show idle hide

(define (domain transport)
  (:requirements :strips :typing :numeric-fluents :action-costs :durative-actions)

  (:types agent wp box - object)

  (:predicates
    (controllable ?a - agent)           ; static: the robot
    (partner ?a ?other - agent)         ; static: ?a may take a box out of the hand of ?other
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
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?w)))))))
