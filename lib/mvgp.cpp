// mvgp
