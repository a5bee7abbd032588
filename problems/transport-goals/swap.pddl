;; One world, eight goals: who carries what where is not said.
;; The problems of this folder share their objects and init; only name and goal differ.

(define (problem swap)
  (:domain transport)
  (:objects
    robot human - agent
    wp0 wp1 wp2 wp3 wp4 wp5 - wp
    green blue red - box)
  (:init
    (controllable robot)
    (partner human robot) (partner robot human)

    (path wp0 wp1) (path wp0 wp2) (path wp0 wp3) (path wp0 wp4) (path wp0 wp5)
    (path wp1 wp0) (path wp1 wp2) (path wp1 wp3) (path wp1 wp4) (path wp1 wp5)
    (path wp2 wp0) (path wp2 wp1) (path wp2 wp3) (path wp2 wp4) (path wp2 wp5)
    (path wp3 wp0) (path wp3 wp1) (path wp3 wp2) (path wp3 wp4) (path wp3 wp5)
    (path wp4 wp0) (path wp4 wp1) (path wp4 wp2) (path wp4 wp3) (path wp4 wp5)
    (path wp5 wp0) (path wp5 wp1) (path wp5 wp2) (path wp5 wp3) (path wp5 wp4)

    (reach human wp0) (reach human wp1) (reach human wp2) (reach human wp3) (reach human wp4) (reach human wp5)
    (reach robot wp0) (reach robot wp1) (reach robot wp2) (reach robot wp3) (reach robot wp4) (reach robot wp5)

    (at human wp1) (free human) (idle human)
    (at robot wp0) (free robot) (idle robot)
    (box-at green wp3) (box-at blue wp4) (box-at red wp2)

    (= (total-cost) 0)
    (= (knowledge human) 1) (= (motivation human) 1)
    (= (capacity human wp0) 1) (= (capacity human wp1) 1) (= (capacity human wp2) 1)
    (= (capacity human wp3) 1) (= (capacity human wp4) 1) (= (capacity human wp5) 1)
    (= (knowledge robot) 1) (= (motivation robot) 1)
    (= (capacity robot wp0) 1) (= (capacity robot wp1) 1) (= (capacity robot wp2) 1)
    (= (capacity robot wp3) 1) (= (capacity robot wp4) 1) (= (capacity robot wp5) 1))
  (:goal (and (box-at green wp4) (box-at blue wp3)))
  (:metric minimize (+ (total-cost) (* 0.17 (total-time)))))
