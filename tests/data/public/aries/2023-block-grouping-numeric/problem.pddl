(define (problem instance_20_5_2_1-problem)
 (:domain instance_20_5_2_1-domain)
 (:objects
   b1 b2 b3 b4 b5 - block
 )
 (:init (= (x b3) 17) (= (y b3) 14) (= (x b4) 17) (= (y b4) 8) (= (x b2) 19) (= (y b2) 5) (= (x b1) 20) (= (y b1) 14) (= (x b5) 5) (= (y b5) 5) (= (max_x) 20) (= (min_x) 1) (= (max_y) 20) (= (min_y) 1))
 (:goal (and (= (x b1) (x b2)) (= (y b1) (y b2)) (= (x b1) (x b3)) (= (y b1) (y b3)) (= (x b1) (x b4)) (= (y b1) (y b4)) (or (not (= (x b1) (x b5))) (not (= (y b1) (y b5)))) (= (x b2) (x b3)) (= (y b2) (y b3)) (= (x b2) (x b4)) (= (y b2) (y b4)) (or (not (= (x b2) (x b5))) (not (= (y b2) (y b5)))) (= (x b3) (x b4)) (= (y b3) (y b4)) (or (not (= (x b3) (x b5))) (not (= (y b3) (y b5)))) (or (not (= (x b4) (x b5))) (not (= (y b4) (y b5))))))
)
