;; One flat, ten goals: Anna cooks and reaches every room, the robot lifts the suitcase.
;; The problems of this folder share their objects and init; only name and goal differ.

(define (problem tidy-up)
  (:domain household)
  (:objects
    robot anna - agent
    kitchen hall living bath bedroom - room
    soup - meal
    basket - laundry
    fern - plant
    suitcase - luggage)
  (:init
    (controllable robot)

    (door kitchen hall) (door hall kitchen)
    (door kitchen living) (door living kitchen)
    (door hall living) (door living hall)
    (door hall bath) (door bath hall)
    (door hall bedroom) (door bedroom hall)

    (enters robot kitchen) (enters robot hall) (enters robot living) (enters robot bedroom)
    (enters anna kitchen) (enters anna hall) (enters anna living) (enters anna bath) (enters anna bedroom)
    (lifts robot soup) (lifts robot basket) (lifts robot fern) (lifts robot suitcase)
    (lifts anna soup) (lifts anna basket) (lifts anna fern)
    (cooks anna) (stove kitchen) (washer bath) (tap kitchen) (tap bath)

    (at robot hall) (free robot) (idle robot)
    (at anna living) (free anna) (idle anna)
    (lies soup living) (lies basket bedroom) (lies fern bedroom) (lies suitcase hall)

    (= (total-cost) 0)
    (= (knowledge robot) 1) (= (motivation robot) 1)
    (= (capacity robot kitchen) 1) (= (capacity robot hall) 1) (= (capacity robot living) 1)
    (= (capacity robot bath) 1) (= (capacity robot bedroom) 1)
    (= (knowledge anna) 1) (= (motivation anna) 1)
    (= (capacity anna kitchen) 1) (= (capacity anna hall) 1) (= (capacity anna living) 1)
    (= (capacity anna bath) 1) (= (capacity anna bedroom) 1))
  (:goal (and (lies soup kitchen) (lies basket bath) (lies suitcase bedroom)))
  (:metric minimize (+ (total-cost) (* 0.5 (total-time)))))
