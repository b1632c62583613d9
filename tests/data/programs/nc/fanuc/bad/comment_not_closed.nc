(expect: unclosed-comment 2:8)
G00 X1 (comment
