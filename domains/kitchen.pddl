;; title: a human and a robot cook one of many recipes, step by step
;; source: Ghose, Gitelson, Jin, Abawe, Vázquez, Scassellati: I've Changed My Mind: Robots Adapting to Changing
;;         Human Goals during Collaboration (section IV-A: kitchen, meals, signatures of actions);
;;         agent state as a cost: Izquierdo-Badiola et al., Improved Task Planning through Failure Anticipation
;; changed: the paper prints signatures only, so every condition, effect and recipe is ours. The agent comes
;;          first; mix names its dish, and cook and blend what they work in, so that each fact has one step
;;          that adds it and no recipe's step waits for, or is opened by, a step of another recipe
;; time-unit: step (the paper: every step takes the same time, whoever does it)
;; abstraction: ingredients are never used up and nothing is washed, emptied or switched off: effects only add
;;              facts, except that get removes "stored" and every step but serve removes "served". So a meal
;;              counts as served only if nothing was done after serving; serve is last in every optimal plan.
;;              One predicate, goes-in, says what may be poured where; the sink is no object, water is collected
;;              in the dish. A station is whatever a step is done at, and capacity is how hard that is for
;;              the agent: the thing to fetch (its place on the shelf), the dish, the appliance. serve is done
;;              at no station.

;; hrcplan: say get grab, take, took, fetch, bring, pick up, get out, reach for, hand, need, want
;; hrcplan: say pour add, put, put in, put into, place, tip, tip into, throw, throw in, toss in, drop, drop in
;; hrcplan: say pour sprinkle, scatter, drizzle, dash, dash of, pinch of, spoon into, season, season with, salt, salt water
;; hrcplan: say pour in, goes in, goes into, go into, add in, add to, pour into, pour in, top with, start adding
;; hrcplan: say mix stir, stir in, stir into, mix in, mix into, mix with, mix together, fold, fold in, whisk, toss
;; hrcplan: say mix combine
;; hrcplan: say cook boil, fry, simmer, saute, heat, heat up, roast, warm up, start cooking
;; hrcplan: say blend blitz, whizz, puree, liquidize, crush, blend in, put through
;; hrcplan: say turn_on switch on, put on, start, light, preheat, on
;; hrcplan: say collect_water fill, fill with water, fill at tap, water into, water in, get water, get water for
;; hrcplan: say collect_water add water, run water, run water into, pour water into, put water in
;; hrcplan: say reduce_heat turn down, turn heat down, turn down heat, lower heat, lower, low heat, set to low, low
;; hrcplan: say reduce_heat decrease heat, lower flame, heat on low heat, allow to simmer, turn down temperature, turn temperature down
;; hrcplan: say serve serve up, ready, plate, plate up, dish up, bon appetit, eat, done
;; hrcplan: call pasta macaroni, spaghetti, noodles
;; hrcplan: call beans kidney beans, bean
;; hrcplan: call potato spuds
;; hrcplan: call lettuce salad leaves
;; hrcplan: call cheese parmesan, feta, mozzarella
;; hrcplan: call basil herbs
;; hrcplan: call oil olive oil
;; hrcplan: call nuts walnuts, almonds, hazelnuts
;; hrcplan: call oats oatmeal, porridge oats
;; hrcplan: call yogurt yoghurt
;; hrcplan: call berries strawberries, blueberries, raspberries
;; hrcplan: call measuring-cup measure, jug
;; hrcplan: call serving-spoon ladle, big spoon, spoon for serving
;; hrcplan: call eating-spoon small spoon, teaspoon, spoon for eating
;; hrcplan: call bowl salad bowl
;; hrcplan: call glass tumbler
;; hrcplan: call pan pot, saucepan, frying pan, skillet
;; hrcplan: call stove hob, burner, cooker
;; hrcplan: call blender mixer, liquidizer
;; hrcplan: show ingredient green
;; hrcplan: show tool gray
;; hrcplan: show dish sky
;; hrcplan: show appliance red

(define (domain kitchen)
  (:requirements :strips :typing :numeric-fluents :action-costs)

  (:types
    agent station - object
    ingredient tool equipment - station
    dish appliance - equipment
    cookware - dish
    cooker - appliance)

  (:predicates
    (controllable ?a - agent)                   ; static: the robot
    (goes-in ?i - ingredient ?d - equipment)    ; static: what may be poured where
    (stored ?x - station)                       ; on the shelf
    (available ?x - station)                    ; in the workspace; of equipment: ready to be filled
    (in ?i - ingredient ?d - equipment)
    (has-water ?d - dish)
    (on ?p - appliance)
    (low ?p - cooker)
    (mixed ?i - ingredient ?d - dish)
    (cooked ?i - ingredient)
    (blended ?i - ingredient)
    (served))

  (:functions
    (knowledge ?a - agent)
    (motivation ?a - agent)
    (capacity ?a - agent ?x - station)
    (total-cost))

  (:action get
    :parameters (?a - agent ?i - station)
    :precondition (stored ?i)
    :effect (and (available ?i) (not (stored ?i)) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?i)))))

  (:action pour
    :parameters (?a - agent ?i - ingredient ?d - equipment)
    :precondition (and (goes-in ?i ?d) (available ?i) (available ?d))
    :effect (and (in ?i ?d) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?d)))))

  (:action mix
    :parameters (?a - agent ?i - ingredient ?d - dish)
    :precondition (in ?i ?d)
    :effect (and (mixed ?i ?d) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?d)))))

  (:action cook
    :parameters (?a - agent ?i - ingredient ?d - cookware ?p - cooker)
    :precondition (and (in ?i ?d) (has-water ?d) (on ?p))
    :effect (and (cooked ?i) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?p)))))

  (:action blend
    :parameters (?a - agent ?i - ingredient ?p - appliance)
    :precondition (and (in ?i ?p) (on ?p))
    :effect (and (blended ?i) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?p)))))

  (:action turn_on
    :parameters (?a - agent ?p - appliance)
    :precondition (and)
    :effect (and (on ?p) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?p)))))

  (:action collect_water
    :parameters (?a - agent ?d - dish)
    :precondition (available ?d)
    :effect (and (has-water ?d) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?d)))))

  (:action reduce_heat
    :parameters (?a - agent ?p - cooker)
    :precondition (on ?p)
    :effect (and (low ?p) (not (served))
      (increase (total-cost) (+ (+ (knowledge ?a) (motivation ?a)) (capacity ?a ?p)))))

  (:action serve
    :parameters (?a - agent)
    :precondition (and)
    :effect (and (served)
      (increase (total-cost) (+ (knowledge ?a) (motivation ?a))))))
