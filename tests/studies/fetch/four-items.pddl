(define (problem four-items)
  (:domain fetch)
  (:objects arm worker - agent nut bolt nail screw - item)
  (:init
    (controllable arm) (rested arm) (rested worker)
    (away nut) (away bolt) (away nail) (away screw)
    (= (total-cost) 0) (= (tiredness arm) 1) (= (tiredness worker) 1))
  (:goal (and (here nut) (here bolt) (here nail) (here screw)))
  (:metric minimize (+ (total-cost) (* 0.5 (total-time)))))
