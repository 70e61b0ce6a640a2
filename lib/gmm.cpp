// gmm
