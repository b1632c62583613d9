(expect: no-operation 0:0, no-program-end 0:0)
(nothing)
