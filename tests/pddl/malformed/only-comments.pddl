;; expect: empty
;; nothing else
