// dtw
