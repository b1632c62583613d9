(expect: modal-conflict 2:1)
G53.1
