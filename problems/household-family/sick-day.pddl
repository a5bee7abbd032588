;; One flat, eight goals, two people: Anna cooks, Ben is small and carries no basket.
;; The problems of this folder share their objects and init; only name and goal differ.

(define (problem sick-day)
  (:domain household)
  (:objects
    robot anna ben - agent
    kitchen hall living bath bedroom - room
    soup - meal
    basket - laundry
    fern - plant)
  (:init
    (controllable robot)

    (door kitchen hall) (door hall kitchen)
    (door kitchen living) (door living kitchen)
    (door hall living) (door living hall)
    (door hall bath) (door bath hall)
    (door hall bedroom) (door bedroom hall)

    (enters robot kitchen) (enters robot hall) (enters robot living) (enters robot bedroom)
    (enters anna kitchen) (enters anna hall) (enters anna living) (enters anna bath) (enters anna bedroom)
    (enters ben kitchen) (enters ben hall) (enters ben living) (enters ben bath) (enters ben bedroom)
    (lifts robot soup) (lifts robot basket) (lifts robot fern)
    (lifts anna soup) (lifts anna basket) (lifts anna fern)
    (lifts ben soup) (lifts ben fern)
    (cooks anna) (stove kitchen) (washer bath) (tap kitchen) (tap bath)

    (at robot hall) (free robot) (idle robot)
    (at anna bedroom) (free anna) (idle anna)
    (at ben living) (free ben) (idle ben)
    (lies soup living) (lies basket bedroom) (lies fern bedroom)

    (= (total-cost) 0)
    (= (knowledge robot) 1) (= (motivation robot) 1)
    (= (capacity robot kitchen) 1) (= (capacity robot hall) 1) (= (capacity robot living) 1)
    (= (capacity robot bath) 1) (= (capacity robot bedroom) 1)
    (= (knowledge anna) 1) (= (motivation anna) 1)
    (= (capacity anna kitchen) 1) (= (capacity anna hall) 1) (= (capacity anna living) 1)
    (= (capacity anna bath) 1) (= (capacity anna bedroom) 1)
    (= (knowledge ben) 1) (= (motivation ben) 1)
    (= (capacity ben kitchen) 1) (= (capacity ben hall) 1) (= (capacity ben living) 1)
    (= (capacity ben bath) 1) (= (capacity ben bedroom) 1))
  (:goal (and (cooked soup) (lies soup bedroom) (watered fern)))
  (:metric minimize (+ (total-cost) (* 0.5 (total-time)))))
