;; Oatmeal with berries or banana.
;; Recipes with choices: any way of meeting the goal is a valid one. The recipes of this folder share
;; their objects and init with problems/kitchen; only name and goal differ.

(define (problem oatmeal-any-fruit)
  (:domain kitchen)
  (:requirements :disjunctive-preconditions)
  (:objects
    robot human - agent
    pasta lentils beans potato carrot onion tomato mushroom spinach lettuce cucumber olives cheese
    basil pepper salt oil nuts oats milk yogurt honey cinnamon chocolate raisins berries banana
    apple mango - ingredient
    serving-spoon eating-spoon measuring-cup - tool
    bowl glass - dish
    pan - cookware
    stove - cooker
    blender - appliance)
  (:init
    (controllable robot)
    (available blender)
    (stored pasta) (stored lentils) (stored beans) (stored potato) (stored carrot) (stored onion)
    (stored tomato) (stored mushroom) (stored spinach) (stored lettuce) (stored cucumber)
    (stored olives) (stored cheese) (stored basil) (stored pepper) (stored salt) (stored oil)
    (stored nuts) (stored oats) (stored milk) (stored yogurt) (stored honey) (stored cinnamon)
    (stored chocolate) (stored raisins) (stored berries) (stored banana) (stored apple)
    (stored mango) (stored serving-spoon) (stored eating-spoon) (stored measuring-cup) (stored bowl)
    (stored glass) (stored pan)

    (goes-in pasta pan) (goes-in lentils pan) (goes-in beans pan) (goes-in potato pan)
    (goes-in carrot pan) (goes-in onion pan) (goes-in tomato pan) (goes-in mushroom pan)
    (goes-in spinach pan) (goes-in salt pan) (goes-in oats pan) (goes-in milk pan)
    (goes-in raisins pan) (goes-in apple pan)
    (goes-in beans bowl) (goes-in carrot bowl) (goes-in onion bowl) (goes-in tomato bowl)
    (goes-in mushroom bowl) (goes-in spinach bowl) (goes-in lettuce bowl) (goes-in cucumber bowl)
    (goes-in olives bowl) (goes-in cheese bowl) (goes-in basil bowl) (goes-in pepper bowl)
    (goes-in oil bowl) (goes-in nuts bowl) (goes-in honey bowl) (goes-in cinnamon bowl)
    (goes-in chocolate bowl) (goes-in raisins bowl) (goes-in berries bowl) (goes-in banana bowl)
    (goes-in nuts glass) (goes-in oats glass) (goes-in yogurt glass) (goes-in honey glass)
    (goes-in cinnamon glass) (goes-in chocolate glass) (goes-in raisins glass)
    (goes-in berries glass) (goes-in banana glass) (goes-in apple glass) (goes-in mango glass)
    (goes-in spinach blender) (goes-in nuts blender) (goes-in oats blender) (goes-in milk blender)
    (goes-in yogurt blender) (goes-in honey blender) (goes-in cinnamon blender)
    (goes-in chocolate blender) (goes-in berries blender) (goes-in banana blender)
    (goes-in apple blender) (goes-in mango blender)

    (= (total-cost) 0)
    (= (knowledge human) 1) (= (motivation human) 1)
    (= (capacity human pasta) 1) (= (capacity human lentils) 1) (= (capacity human beans) 1)
    (= (capacity human potato) 1) (= (capacity human carrot) 1) (= (capacity human onion) 1)
    (= (capacity human tomato) 1) (= (capacity human mushroom) 1) (= (capacity human spinach) 1)
    (= (capacity human lettuce) 1) (= (capacity human cucumber) 1) (= (capacity human olives) 1)
    (= (capacity human cheese) 1) (= (capacity human basil) 1) (= (capacity human pepper) 1)
    (= (capacity human salt) 1) (= (capacity human oil) 1) (= (capacity human nuts) 1)
    (= (capacity human oats) 1) (= (capacity human milk) 1) (= (capacity human yogurt) 1)
    (= (capacity human honey) 1) (= (capacity human cinnamon) 1) (= (capacity human chocolate) 1)
    (= (capacity human raisins) 1) (= (capacity human berries) 1) (= (capacity human banana) 1)
    (= (capacity human apple) 1) (= (capacity human mango) 1) (= (capacity human serving-spoon) 1)
    (= (capacity human eating-spoon) 1) (= (capacity human measuring-cup) 1)
    (= (capacity human bowl) 1) (= (capacity human glass) 1) (= (capacity human pan) 1)
    (= (capacity human blender) 1) (= (capacity human stove) 1)
    (= (knowledge robot) 1) (= (motivation robot) 1)
    (= (capacity robot pasta) 1) (= (capacity robot lentils) 1) (= (capacity robot beans) 1)
    (= (capacity robot potato) 1) (= (capacity robot carrot) 1) (= (capacity robot onion) 1)
    (= (capacity robot tomato) 1) (= (capacity robot mushroom) 1) (= (capacity robot spinach) 1)
    (= (capacity robot lettuce) 1) (= (capacity robot cucumber) 1) (= (capacity robot olives) 1)
    (= (capacity robot cheese) 1) (= (capacity robot basil) 1) (= (capacity robot pepper) 1)
    (= (capacity robot salt) 1) (= (capacity robot oil) 1) (= (capacity robot nuts) 1)
    (= (capacity robot oats) 1) (= (capacity robot milk) 1) (= (capacity robot yogurt) 1)
    (= (capacity robot honey) 1) (= (capacity robot cinnamon) 1) (= (capacity robot chocolate) 1)
    (= (capacity robot raisins) 1) (= (capacity robot berries) 1) (= (capacity robot banana) 1)
    (= (capacity robot apple) 1) (= (capacity robot mango) 1) (= (capacity robot serving-spoon) 1)
    (= (capacity robot eating-spoon) 1) (= (capacity robot measuring-cup) 1)
    (= (capacity robot bowl) 1) (= (capacity robot glass) 1) (= (capacity robot pan) 1)
    (= (capacity robot blender) 1) (= (capacity robot stove) 1))
  (:goal (and
    (available eating-spoon) (available measuring-cup) (cooked oats) (in milk pan) (or
    (mixed berries bowl) (mixed banana bowl)) (in honey bowl) (mixed cinnamon bowl) (low
    stove)
    (served)))
  (:metric minimize (total-cost)))
