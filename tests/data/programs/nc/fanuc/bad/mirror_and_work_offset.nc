(expect: modal-conflict 3:1)
G51.1 X0
G55
