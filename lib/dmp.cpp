// dmp
