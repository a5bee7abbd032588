;; title: people and a robot of one household carry, cook, wash and water
;; source: written for hrcplan
;; time-unit: s
;; abstraction: a hand holds one item; rooms hold any number of agents and items; nothing becomes dirty or
;;              cold again; agent state (knowledge, motivation, capacity) is a cost per action, low =
;;              contributing, and capacity is how hard it is for the agent to go to a room and to work there
;; hrcplan: say go going, walk, come, move, head, enter, drive, off to, leave for
;; hrcplan: say pick-up take, grab, get, fetch, lift, collect, take out
;; hrcplan: say put-down put, place, set down, set, drop, lay down, put back
;; hrcplan: say cook make, prepare, boil, heat, heat up, warm, warm up, simmer
;; hrcplan: say wash do, clean, launder, run, wash up
;; hrcplan: say water sprinkle, spray, give water, give water to, give a drink
;; hrcplan: call meal food, pot
;; hrcplan: call laundry washing, clothes, linen, basket
;; hrcplan: call plant flower, pot plant
;; hrcplan: call luggage bag
;; hrcplan: call soup dinner, supper, stew
;; hrcplan: call suitcase case, trunk
;; hrcplan: call living living room, lounge
;; hrcplan: call bath bathroom
;; hrcplan: call hall hallway, corridor
;; hrcplan: show meal orange
;; hrcplan: show laundry sky
;; hrcplan: show plant green
;; hrcplan: show luggage purple
;; hrcplan: show idle hide

(define (domain household)
  (:requirements :strips :typing :numeric-fluents :action-costs :durative-actions)

  (:types
    agent room item - object
    meal laundry plant luggage - item)

  (:predicates
    (controllable ?a - agent)          ; static: the robot
    (door ?from ?to - room)            ; static: the map
    (enters ?a - agent ?r - room)      ; static: where an agent can go
    (lifts ?a - agent ?i - item)       ; static: what an agent can carry
    (cooks ?a - agent)                 ; static: who may use a stove
    (stove ?r - room)                  ; static
    (washer ?r - room)                 ; static: a washing machine
    (tap ?r - room)                    ; static
    (at ?a - agent ?r - room)
    (lies ?i - item ?r - room)
    (free ?a - agent)                  ; the hand is empty
    (holding ?a - agent ?i - item)
    (idle ?a - agent)                  ; token: one action per agent at a time
    (cooked ?m - meal)
    (washed ?l - laundry)
    (watered ?p - plant))

  (:functions
    (knowledge ?a - agent)
    (motivation ?a - agent)
    (capacity ?a - agent ?r - room)
    (total-cost))

  (:durative-action go
    :parameters (?a - agent ?from - room ?to - room)
    :duration (= ?duration 10)
    :condition (and
      (at start (idle ?a))
      (at start (at ?a ?from))
      (at start (door ?from ?to))
      (at start (enters ?a ?to)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (at ?a ?from)))
      (at end (at ?a ?to))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?to))))))

  (:durative-action pick-up
    :parameters (?a - agent ?i - item ?r - room)
    :duration (= ?duration 5)
    :condition (and
      (at start (idle ?a))
      (at start (free ?a))
      (at start (lifts ?a ?i))
      (at start (lies ?i ?r))
      (over all (at ?a ?r)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (free ?a)))
      (at start (not (lies ?i ?r)))
      (at end (holding ?a ?i))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?r))))))

  (:durative-action put-down
    :parameters (?a - agent ?i - item ?r - room)
    :duration (= ?duration 5)
    :condition (and
      (at start (idle ?a))
      (at start (holding ?a ?i))
      (over all (at ?a ?r)))
    :effect (and
      (at start (not (idle ?a)))
      (at start (not (holding ?a ?i)))
      (at end (lies ?i ?r))
      (at end (free ?a))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?r))))))

  (:durative-action cook
    :parameters (?a - agent ?m - meal ?r - room)
    :duration (= ?duration 60)
    :condition (and
      (at start (idle ?a))
      (at start (cooks ?a))
      (at start (stove ?r))
      (over all (lies ?m ?r))
      (over all (at ?a ?r)))
    :effect (and
      (at start (not (idle ?a)))
      (at end (cooked ?m))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?r))))))

  (:durative-action wash
    :parameters (?a - agent ?l - laundry ?r - room)
    :duration (= ?duration 40)
    :condition (and
      (at start (idle ?a))
      (at start (washer ?r))
      (over all (lies ?l ?r))
      (over all (at ?a ?r)))
    :effect (and
      (at start (not (idle ?a)))
      (at end (washed ?l))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?r))))))

  (:durative-action water
    :parameters (?a - agent ?p - plant ?r - room)
    :duration (= ?duration 5)
    :condition (and
      (at start (idle ?a))
      (at start (tap ?r))
      (over all (holding ?a ?p))
      (over all (at ?a ?r)))
    :effect (and
      (at start (not (idle ?a)))
      (at end (watered ?p))
      (at end (idle ?a))
      (at start (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?r)))))))
