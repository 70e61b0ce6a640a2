// alignment
