// basis
