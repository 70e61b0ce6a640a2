// gmr
