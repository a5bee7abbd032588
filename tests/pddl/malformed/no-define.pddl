(domain d)  ;; expect: outside-define
